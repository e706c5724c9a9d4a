// The linear problem of a short mission by QR, by normal equations and by the smoother: what agrees to 1e-6, and what the
// condition number takes from normal equations.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "coast/estimate/sparse_cholesky.hpp"
#include "estimate/batch_mission.hpp"
#include "estimate/linear_problem.hpp"
#include "support/spectra.hpp"

namespace coast {
namespace {

using namespace estimate;

struct LinearMission {
  explicit LinearMission(double accelerometer_noise_ug) {
    const noise::ImuErrorModel model = test::error_model(test::still_model(accelerometer_noise_ug));
    recording = test::make_recording(test::still_recording(9.0), &model, 7);
    filter = std::make_unique<ForwardFilter>(recording.mission(), model, test::still_options());
    std::mt19937_64 random(7);
    problem = std::make_unique<test::LinearProblem>(
        recording.mission(), *filter,
        test::drawn_start(*filter, recording.truth(test::mission_start()), test::kStillStart, random));
    smoothed = smooth(problem->knots(), filter->layout());
  }
  test::Recording recording;
  std::unique_ptr<ForwardFilter> filter;
  std::unique_ptr<test::LinearProblem> problem;
  std::vector<SmoothedKnot> smoothed;
};

/// A solution, and the covariance of some unknowns in it.
struct LinearSolution {
  Eigen::VectorXd u;
  std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> covariance;
};

// Householder reflections of J itself, columns scaled to length one: no product of J with itself.
LinearSolution by_qr(const test::LinearProblem& problem) {
  const Eigen::VectorXd scale = problem.J().colwise().norm().cwiseInverse();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(problem.J() * scale.asDiagonal());
  const Eigen::Index n = problem.J().cols();
  const auto R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::VectorXd turned = (qr.householderQ().transpose() * problem.target()).head(n);
  const Eigen::MatrixXd root = scale.asDiagonal() * R.solve(Eigen::MatrixXd::Identity(n, n));
  return {scale.cwiseProduct(R.solve(turned)), [root](const std::vector<Eigen::Index>& which) -> Eigen::MatrixXd {
            return root(which, Eigen::all) * root(which, Eigen::all).transpose();
          }};
}

LowerTriangle normal_equations(const test::LinearProblem& problem) {
  const Eigen::MatrixXd A = problem.J().transpose() * problem.J();
  const Eigen::Index size = problem.size(), border = problem.links() * size;
  std::vector<Eigen::Triplet<double>> elements;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      if (i >= border || i / size <= j / size + 1) elements.emplace_back(i, j, A(i, j));
  LowerTriangle lower(A.rows(), A.cols());
  lower.setFromTriplets(elements.begin(), elements.end());
  return lower;
}

/// As the batch smoother does it. @param condition  what it reports
LinearSolution by_sparse_cholesky(const test::LinearProblem& problem, double& condition) {
  const LowerTriangle lower = normal_equations(problem);
  SparseCholesky factor(lower);
  factor.factorize(lower);
  condition = factor.condition();
  const Eigen::VectorXd u = factor.solve(problem.J().transpose() * problem.target());
  const auto inverse = std::make_shared<SelectedInverse>(factor.invert());
  return {u, [inverse](const std::vector<Eigen::Index>& which) { return inverse->block(which); }};
}

/// Largest deviations from the smoother over all knots and states: of states in sigmas, of covariances (those that the
/// smoother tells: all variances, and the blocks of position, velocity and attitude) relative to the product of sigmas.
struct Deviation {
  double state = 0.0;
  double covariance = 0.0;
};

Deviation from_smoother(const LinearMission& mission, const LinearSolution& solution) {
  const test::LinearProblem& problem = *mission.problem;
  Deviation worst;
  for (Eigen::Index k = 0; k < problem.links(); ++k) {
    const SmoothedKnot& smoothed = mission.smoothed[static_cast<std::size_t>(k)];
    const Knot knot = problem.knots().at(static_cast<std::size_t>(k));
    const std::vector<Eigen::Index> columns = problem.columns(k);
    const Eigen::MatrixXd T = problem.map(k);
    const Eigen::VectorXd d = T * solution.u(columns) + problem.offset(k);
    const Eigen::MatrixXd P = T * solution.covariance(columns) * T.transpose();
    Eigen::VectorXd expected = knot.post.x - smoothed.x;
    expected.head<kNav>() = error_between(knot.post.nav, smoothed.nav);
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      if (!(smoothed.sd(i) > 1e-15)) continue;  // known at the start
      worst.state = std::max(worst.state, std::abs(d(i) - expected(i)) / smoothed.sd(i));
      worst.covariance = std::max(worst.covariance, std::abs(P(i, i) / (smoothed.sd(i) * smoothed.sd(i)) - 1.0));
    }
    const record::NavCovariance cov = nav_covariance_n(P.topLeftCorner<kNav, kNav>(), knot.post.nav.r_eb_e);
    for (const auto& [mine, theirs] :
         {std::pair(cov.position, smoothed.cov.position), std::pair(cov.velocity, smoothed.cov.velocity),
          std::pair(cov.attitude, smoothed.cov.attitude)}) {
      const Eigen::Vector3d scale = theirs.diagonal().cwiseSqrt().cwiseInverse();
      worst.covariance =
          std::max(worst.covariance, (scale.asDiagonal() * (mine - theirs) * scale.asDiagonal()).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

// Coordinates of 4e6 m are rounded to 1e-9 m, 1e-7 of their sigmas here; in the covariance only arithmetic rounds.
TEST(LinearBatch, QrNormalEquationsAndSmootherAgree) {
  const LinearMission mission(300.0);
  double condition = 0.0;
  for (const LinearSolution& solution : {by_qr(*mission.problem), by_sparse_cholesky(*mission.problem, condition)}) {
    const Deviation off = from_smoother(mission, solution);
    EXPECT_LT(off.state, 1e-6);
    EXPECT_LT(off.covariance, 1e-6);
  }
  EXPECT_LT(condition, 1e10);
}

// The quieter the accelerometers, the stiffer are knots tied to each other, and the worse conditioned are the normal equations.
// QR has the root of their condition number and goes on to agree with the smoother, which inverts nothing.
TEST(LinearBatch, ConditionTakesDigitsFromNormalEquationsAlone) {
  double before = 0.0;
  for (const double noise : {300.0, 20.0, 2.0}) {
    const LinearMission mission(noise);
    double condition = 0.0;
    const Deviation normal = from_smoother(mission, by_sparse_cholesky(*mission.problem, condition));
    const Deviation qr = from_smoother(mission, by_qr(*mission.problem));
    SCOPED_TRACE(
        fmt::format("{} ug/sqrt(Hz): condition {:.1e}; normal equations off by {:.1e} of a sigma and {:.1e} of a "
                    "variance, QR by {:.1e} and {:.1e}",
                    noise, condition, normal.state, normal.covariance, qr.state, qr.covariance));
    EXPECT_LT(qr.state, 1e-6);
    EXPECT_LT(qr.covariance, 1e-6);
    // What the report says of it; where QR is off as well, by the rounding of coordinates, there is no more to be seen.
    const double rounding = BatchReport{.condition = condition}.rounding();
    EXPECT_LT(normal.state, 4.0 * rounding + 1e-6);
    EXPECT_LT(normal.covariance, 4.0 * rounding);
    EXPECT_GT(normal.covariance, 0.25 * rounding);
    EXPECT_GT(condition, 10.0 * before);
    before = condition;
  }
}

// The reported condition number, by power iterations, against eigenvalues.
TEST(LinearBatch, ConditionIsThatOfTheScaledEquations) {
  const LinearMission mission(300.0);
  const Eigen::VectorXd scale = mission.problem->J().colwise().norm().cwiseInverse();
  const double ratio = test::condition_number(mission.problem->J() * scale.asDiagonal());
  double condition = 0.0;
  (void)by_sparse_cholesky(*mission.problem, condition);
  EXPECT_GT(condition, 0.5 * ratio * ratio);  // iterations end before they are there
  EXPECT_LT(condition, 1.001 * ratio * ratio);
}

}  // namespace
}  // namespace coast
