#include "relative_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "coast/carrier/signals.hpp"
#include "doppler_displacement.hpp"
#include "receiver_track.hpp"

namespace coast::carrier {

namespace {

using Kind = Unknown::Kind;

constexpr double kUnknownPosition = 30.0;   // m, sd of a single-point position, with a margin
constexpr double kUnknownAmbiguity = 30.0;  // m, sd of code minus phase, with a margin
// Phase multipath is correlated: averages are not as accurate as with white noise, and old ambiguities not exact.
constexpr double kAmbiguityWalk = 0.003;  // cycles/sqrt(s)

Unknown ambiguity_of(const SatelliteDifference& satellite, const BandDifference& band) {
  return {Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
}

/// GLONASS ambiguities are integers if the clock of the phases is known: a metre of that clock is 0.002 cycles between adjacent
/// channels. It is known from codes, including hardware delays.
double unknown_variance(const SatelliteDifference& satellite, const BandDifference& band) {
  constexpr double kOfGlonass = 5.0;  // m
  const bool glonass = satellite.satellite.system == record::SatelliteSystem::kGlonass;
  const double sd = (glonass ? kOfGlonass : kUnknownAmbiguity) / band.wavelength();
  return sd * sd;
}

/// Phase minus code, cycles; minus the code of another band if its own is missing.
std::optional<double> from_code(const SatelliteDifference& satellite, const BandDifference& band) {
  std::optional<double> code = band.code;
  for (const BandDifference& other : satellite.bands)
    if (!code) code = other.code;
  if (!code) return std::nullopt;
  return (*band.phase - *code) / band.wavelength();
}

Innovation innovation_of(Eigen::MatrixXd H, Eigen::VectorXd v, const RelativeState& state) {
  Innovation in;
  in.H = std::move(H);
  in.v = std::move(v);
  in.PHt = state.P * in.H.transpose();
  Eigen::MatrixXd S = in.H * in.PHt;
  S.diagonal().array() += 1.0;
  in.S.compute(S);
  return in;
}

/// Of the differences, by a sparse H and block by block: a row has a handful of unknowns, and a difference those of its group.
Innovation innovation_of(const DoubleDifferences& dd, const RelativeState& state) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> H = dd.H.sparseView();
  Innovation in;
  in.H = dd.without_clocks(dd.H);
  in.v = dd.without_clocks(dd.residual);
  const Eigen::MatrixXd HP = dd.without_clocks(H * state.P);
  in.PHt = HP.transpose();
  Eigen::MatrixXd S = dd.without_clocks(H * in.PHt);
  S.diagonal().array() += 1.0;
  in.S.compute(S);
  return in;
}

/// Rows whose errors explain the innovations best (Teunissen 1990: w-test), the likeliest first, each given those before it.
std::vector<std::size_t> outliers(const DoubleDifferences& dd, const Innovation& in) {
  constexpr double kSuspicious = 4.5;   // sd
  constexpr double kControlled = 0.01;  // of a variance of one: below, no other row checks this one
  const Eigen::MatrixXd Z = in.S.matrixL().solve(dd.B);
  Eigen::VectorXd g = Z.transpose() * in.S.matrixL().solve(in.v);
  Eigen::VectorXd squares = Z.colwise().squaredNorm();
  Eigen::MatrixXd removed(Z.cols(), 0);  // columns whose products are taken from Z^T Z
  std::vector<std::size_t> all;
  for (;;) {
    Eigen::Index worst = -1;
    double largest = kSuspicious;
    for (Eigen::Index i = 0; i < Z.cols(); ++i) {
      if (squares(i) < kControlled) continue;
      const double w = std::abs(g(i)) / std::sqrt(squares(i));
      if (w < largest) continue;
      largest = w;
      worst = i;
    }
    if (worst < 0) return all;
    all.push_back(static_cast<std::size_t>(worst));
    // To leave a row out is to estimate its error: one step of Gauss's elimination.
    const Eigen::VectorXd column =
        (Z.transpose() * Z.col(worst) - removed * removed.row(worst).transpose()) / std::sqrt(squares(worst));
    g -= column * (g(worst) / std::sqrt(squares(worst)));
    squares -= column.cwiseAbs2();
    squares(worst) = 0.0;
    removed.conservativeResize(Eigen::NoChange, removed.cols() + 1);
    removed.rightCols(1) = column;
  }
}

SignalResidual left_out(const DifferenceEpoch& epoch, const Row& row, double residual) {
  const SatelliteDifference& satellite = epoch.satellites[row.satellite];
  return {satellite.satellite, satellite.bands[row.band].band, row.observable == Observable::kPhase, residual * row.sd, row.sd,
          row.direction,       SignalResidual::Use::kLeftOut};
}

}  // namespace

double longest_unseen(const Unknown& unknown, double interval) {
  constexpr double kIonosphere = 600.0;  // s: until then the previous estimate has information
  const double gap = longest_gap(interval);
  return unknown.kind == Kind::kAmbiguity ? gap : std::max(gap, kIonosphere);
}

RelativeFilter RelativeFilter::coupled(const PpkOptions& options, double interval) {
  RelativeFilter filter(options, interval);
  filter.fewest_ = 2;
  filter.weighting_.one_phase_clock = true;
  return filter;
}

RelativeFilter::RelativeFilter(const PpkOptions& options, double interval) : options_(options), interval_(interval) {
  if (options.noise) weighting_.noise = *options.noise;
}

FloatEpoch RelativeFilter::step(const DifferenceEpoch& epoch, const std::vector<FixedPair>& known) {
  FloatEpoch result;
  const double dt = started_ ? std::abs(epoch.t - last_) : 0.0;
  if (!epoch.age_s) {
    result.shortfall = Shortfall::kNoBase;
    return result;
  }
  if (!predict_position(epoch, dt)) {
    result.shortfall = Shortfall::kNoPosition;
    return result;
  }
  return step_with_position(epoch, dt, known);
}

FloatEpoch RelativeFilter::step_from(RelativeState prior, const DifferenceEpoch& epoch) {
  const double dt = started_ ? std::abs(epoch.t - last_) : 0.0;
  state_ = std::move(prior);
  for (const Unknown& unknown : state_.unknowns())  // of an earlier run, continued by this one
    if (unknown.kind == Kind::kAmbiguity || unknown.kind == Kind::kIonosphere) {
      const bool resumed = seen_.try_emplace(unknown, started_ ? last_ : epoch.t).second;
      if (resumed && unknown.kind == Kind::kAmbiguity) weighting_.known.insert(unknown);
    }
  if (epoch.age_s) return step_with_position(epoch, dt, {});
  FloatEpoch result;
  result.shortfall = Shortfall::kNoBase;
  return result;
}

FloatEpoch RelativeFilter::step_with_position(const DifferenceEpoch& epoch, double dt, const std::vector<FixedPair>& known) {
  FloatEpoch result;
  forget_unseen(epoch);
  predict_ambiguities(epoch, dt);
  const AirStates air = options_.air.value_or(AirStates{});
  const Eigen::Vector3d baseline_e = state_.x.head<3>() - epoch.r_base_e;
  if (air.zenith_delay) predict_zenith_delay(baseline_e, epoch.r_base_e.normalized(), dt);
  if (air.ionosphere) predict_ionosphere(epoch, baseline_e.norm(), dt);
  absorb_new(known);
  last_ = epoch.t;
  last_velocity_ = epoch.alone ? epoch.alone->velocity : std::nullopt;
  started_ = true;
  update(epoch, result);
  return result;
}

bool RelativeFilter::predict_position(const DifferenceEpoch& epoch, double dt) {
  constexpr double kFastest = 50.0;  // m/s, if the displacement of the rover is otherwise unknown
  constexpr double kRoom = 3.0;      // times the sd of a single point with poor geometry
  const bool keeps = started_ && options_.motion == RoverMotion::kStatic;
  if (keeps || move_by_doppler(epoch)) return true;
  if (!started_ && !epoch.alone) return false;
  double sd = kUnknownPosition;
  if (epoch.alone) {
    state_.x.head<3>() = epoch.alone->r_e;
    sd = std::max(sd, kRoom * std::sqrt(epoch.alone->covariance_e.trace()));
  } else {
    sd += kFastest * dt;
  }
  for (Eigen::Index i = 0; i < 3; ++i) state_.reset(i, state_.x(i), sd * sd);
  return true;
}

/// Where all ambiguities begin anew the position goes on, so that wrong codes and reflections are seen as such.
bool RelativeFilter::move_by_doppler(const DifferenceEpoch& epoch) {
  constexpr double kLongest = 2.5;  // s
  constexpr double kFar = 100.0;    // m from the single point: the state is wrong
  const std::optional<double> factor = options_.noise->displacement;
  const double dt = epoch.t - last_;
  if (!factor || !started_ || !last_velocity_ || std::abs(dt) > kLongest || !epoch.alone || !epoch.alone->velocity)
    return false;
  const DopplerDisplacement moved = doppler_displacement(*last_velocity_, *epoch.alone->velocity, dt);
  const Eigen::Vector3d r_e = state_.x.head<3>() + moved.d_e;
  if ((r_e - epoch.alone->r_e).norm() > kFar) return false;
  state_.x.head<3>() = r_e;
  state_.P.topLeftCorner<3, 3>() += *factor * *factor * moved.covariance_e;
  return true;
}

void RelativeFilter::forget_unseen(const DifferenceEpoch& epoch) {
  state_.remove_if([&](const Unknown& unknown) {
    if (unknown.kind != Kind::kAmbiguity && unknown.kind != Kind::kIonosphere) return false;
    return std::abs(epoch.t - seen_.at(unknown)) > longest_unseen(unknown, interval_);
  });
}

void RelativeFilter::predict_zenith_delay(const Eigen::Vector3d& baseline_e, const Eigen::Vector3d& up_e, double dt) {
  constexpr double kLeast = 0.001;     // m
  constexpr double kPerMetre = 4e-7;   // of baseline: a centimetre in 25 km
  constexpr double kPerHeight = 3e-4;  // m/m: error of a mean atmosphere
  constexpr double kWalk = 3e-5;       // m/sqrt(s)
  const Unknown unknown{Kind::kZenithDelay, {}, '0', 0};
  const double sd = kLeast + kPerMetre * baseline_e.norm() + kPerHeight * std::abs(baseline_e.dot(up_e));
  const Eigen::Index i = state_.index(unknown);
  if (i < 0)
    state_.add(unknown, 0.0, sd * sd);
  else
    state_.evolve(i, 1.0, kWalk * kWalk * dt);
}

/// Differences between receivers grow with distance, a millimetre per km in quiet times, and change within half an hour.
void RelativeFilter::predict_ionosphere(const DifferenceEpoch& epoch, double baseline, double dt) {
  constexpr double kPerMetre = 1e-6;   // vertical; more at low elevation
  constexpr double kUnbounded = 10.0;  // m
  constexpr double kTime = 1800.0;     // s
  const double phi = std::exp(-dt / kTime);
  for (Eigen::Index i = 3; i < state_.size(); ++i) {
    const Unknown& unknown = state_.unknowns()[static_cast<std::size_t>(i)];
    if (unknown.kind != Kind::kIonosphere) continue;
    const auto variance = ionosphere_.find(unknown);
    state_.evolve(i, phi, variance == ionosphere_.end() ? 0.0 : (1.0 - phi * phi) * variance->second);
  }
  for (const SatelliteDifference& satellite : epoch.satellites) {
    const Unknown unknown{Kind::kIonosphere, satellite.satellite, '0', 0};
    seen_[unknown] = epoch.t;
    const double slant = 1.0 / std::sqrt(std::max(1.0 - std::pow(0.95 * std::cos(satellite.base_elevation), 2.0), 0.05));
    const double sd = options_.air->unbounded ? kUnbounded : kPerMetre * baseline * slant;
    ionosphere_[unknown] = sd * sd;
    if (state_.index(unknown) < 0) state_.add(unknown, 0.0, sd * sd);
  }
}

void RelativeFilter::predict_ambiguities(const DifferenceEpoch& epoch, double dt) {
  for (Eigen::Index i = 3; i < state_.size(); ++i)
    if (state_.unknowns()[static_cast<std::size_t>(i)].kind == Kind::kAmbiguity)
      state_.evolve(i, 1.0, kAmbiguityWalk * kAmbiguityWalk * dt);
  for (const SatelliteDifference& satellite : epoch.satellites)
    for (const BandDifference& band : satellite.bands) {
      if (!band.phase) continue;
      const Unknown unknown = ambiguity_of(satellite, band);
      seen_[unknown] = epoch.t;
      if (state_.index(unknown) >= 0) continue;
      if (const std::optional<double> value = from_code(satellite, band))
        state_.add(unknown, *value, unknown_variance(satellite, band));
      if (satellite.satellite.system == record::SatelliteSystem::kGlonass) add_inter_frequency_bias(band);
    }
}

/// Receivers of different makes have different phase delays of GLONASS's channels, by some centimetres between adjacent
/// channels, linearly (Wanninger 2012). The slope is constant, and common to all satellites of a band.
void RelativeFilter::add_inter_frequency_bias(const BandDifference& band) {
  constexpr double kSd = 0.03;  // m
  const Unknown unknown{Kind::kInterFrequencyBias, {}, band.band, 0};
  if (glonass_channel(band.band, band.frequency) != 0.0 && state_.index(unknown) < 0) state_.add(unknown, 0.0, kSd * kSd);
}

/// Before the update, so that the phases and codes of the epoch are tested against them.
void RelativeFilter::absorb_new(std::vector<FixedPair> known) {
  constexpr double kHeld = 0.02;  // cycles: the state contains it already
  std::erase_if(known, [&](const FixedPair& p) {
    const Eigen::Index a = state_.index(p.ambiguity), r = state_.index(p.reference);
    return a < 0 || r < 0 || state_.P(a, a) + state_.P(r, r) - 2.0 * state_.P(a, r) < kHeld * kHeld;
  });
  if (known.empty()) return;
  const HeldIntegers integers = held(known, state_);
  absorb(integers.H, integers.nu);
}

void RelativeFilter::start_anew(const SatelliteDifference& satellite, const BandDifference& band) {
  const Unknown unknown = ambiguity_of(satellite, band);
  const Eigen::Index i = state_.index(unknown);
  weighting_.known.erase(unknown);
  state_.reset(i, from_code(satellite, band).value_or(state_.x(i)), unknown_variance(satellite, band));
}

void RelativeFilter::update(const DifferenceEpoch& epoch, FloatEpoch& result) {
  LeftOut out;
  for (;;) {
    result.dd = double_differences(epoch, state_, out, options_.differences, weighting_);
    std::set<std::size_t> satellites;
    for (const Row& row : result.dd.rows) satellites.insert(row.satellite);
    if (satellites.size() < fewest_ || result.dd.empty()) {
      result.shortfall = out.empty() ? Shortfall::kFewSatellites : Shortfall::kContradiction;
      return;
    }
    // That errors last makes a mean worse, not one measurement: codes are tested with the noise of one epoch.
    const Innovation of_one_epoch = innovation_of(result.dd, state_);
    if (of_one_epoch.S.info() != Eigen::Success || !of_one_epoch.v.allFinite()) {  // the state is invalid
      state_ = RelativeState();
      started_ = false;
      result.shortfall = Shortfall::kContradiction;
      return;
    }
    const std::vector<std::size_t> worst = outliers(result.dd, of_one_epoch);
    if (worst.empty()) break;
    for (const std::size_t i : worst) leave_out(i, epoch, out, result);
  }
  inflate_codes(result.dd, epoch, weighting_);
  apply(innovation_of(result.dd, state_), epoch, result);
}

void RelativeFilter::leave_out(std::size_t i, const DifferenceEpoch& epoch, LeftOut& out, FloatEpoch& result) {
  const Row& row = result.dd.rows[i];
  if (row.observable != Observable::kRate)
    result.left_out.push_back(left_out(epoch, row, result.dd.residual(static_cast<Eigen::Index>(i))));
  out.insert({row.satellite, row.band, row.observable});
  if (row.observable != Observable::kPhase) return;
  const SatelliteDifference& satellite = epoch.satellites[row.satellite];
  result.restarted.push_back(ambiguity_of(satellite, satellite.bands[row.band]));
  start_anew(satellite, satellite.bands[row.band]);
}

Eigen::VectorXd RelativeFilter::absorb(const Innovation& in) {
  const Eigen::MatrixXd W = in.S.matrixL().solve(in.PHt.transpose());
  Eigen::VectorXd step = W.transpose() * in.S.matrixL().solve(in.v);
  state_.x += step;
  state_.P -= W.transpose() * W;
  return step;
}

void RelativeFilter::absorb(const Eigen::MatrixXd& H, const Eigen::VectorXd& v) {
  absorb(innovation_of(H, v, state_));
}

void RelativeFilter::apply(const Innovation& in, const DifferenceEpoch& epoch, FloatEpoch& result) {
  result.step = absorb(in);
  result.H = in.H;
  result.nu = in.v;
  result.nis = in.S.matrixL().solve(in.v).squaredNorm();
  result.updated = true;
  for (const Row& row : result.dd.rows)
    if (row.observable == Observable::kCode)
      weighting_.known.insert(ambiguity_of(epoch.satellites[row.satellite], epoch.satellites[row.satellite].bands[row.band]));
}

}  // namespace coast::carrier
