#include "coast/estimate/sparse_cholesky.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "coast/record/error.hpp"

namespace coast::estimate {

namespace {

// Settings, workspace and status of CHOLMOD; factors refer to it.
struct Session {
  Session() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_asis = 0;  // else the next three would be ignored
    common.final_ll = 1;    // with L D L' CHOLMOD does not detect a negative pivot
    common.final_pack = 1;
    common.final_monotonic = 1;
    common.grow0 = 0;  // the memory counted by the analysis is sufficient
    common.grow2 = 0;
    common.postorder = 0;  // it would replace the natural order, which costs a copy of the matrix
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.method[1].ordering = CHOLMOD_AMD;
  }
  ~Session() { cholmod_finish(&common); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Positive status: a warning; a matrix that is not positive definite is treated at the calls where it can occur.
  void require_success() const {
    if (common.status >= CHOLMOD_OK) return;
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status == CHOLMOD_TOO_LARGE) throw std::length_error("SparseCholesky: factor of more than 2^31 entries");
    throw std::logic_error(fmt::format("SparseCholesky: CHOLMOD's status is {}", common.status));
  }

  cholmod_common common;
};

struct FreeFactor {
  cholmod_common* common;
  void operator()(cholmod_factor* factor) const { cholmod_free_factor(&factor, common); }
};
using Factor = std::unique_ptr<cholmod_factor, FreeFactor>;

// CHOLMOD's read-only view of it: its structs have no const.
// The lower triangle by rows is the upper one by columns.
cholmod_sparse view_of(const LowerTriangle& lower) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(lower.rows());
  view.ncol = static_cast<std::size_t>(lower.cols());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = const_cast<int*>(lower.outerIndexPtr());
  view.i = const_cast<int*>(lower.innerIndexPtr());
  view.x = const_cast<double*>(lower.valuePtr());
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense view_of(const Eigen::VectorXd& b) {
  cholmod_dense view{};
  view.nrow = view.nzmax = view.d = static_cast<std::size_t>(b.size());
  view.ncol = 1;
  view.x = const_cast<double*>(b.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

using Lower = Eigen::Map<const Eigen::SparseMatrix<double>>;

// Packed, as set in the session. Rows ascend in every column: CHOLMOD computes L row by row.
Lower lower_of(const cholmod_factor& L) {
  const auto n = static_cast<Eigen::Index>(L.n);
  const auto* start = static_cast<const int*>(L.p);
  return {n, n, start[n], start, static_cast<const int*>(L.i), static_cast<const double*>(L.x)};
}

// Identifies a pattern without storing it: this would need a third of the memory of the matrix.
struct Pattern {
  explicit Pattern(const LowerTriangle& lower)
      : size(lower.rows()),
        starts(hash({lower.outerIndexPtr(), static_cast<std::size_t>(size) + 1})),
        rows(hash({lower.innerIndexPtr(), static_cast<std::size_t>(lower.nonZeros())})) {}
  static std::size_t hash(std::span<const int> numbers) {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
  }
  bool operator==(const Pattern&) const = default;
  Eigen::Index size;
  std::size_t starts, rows;
};

// Part of a column: ascending rows and their values.
struct Column {
  const int* row;
  const double* value;
  int size;
};

// Values of the column at the given rows, all of which are in it and the first of which is the diagonal; `space` for as many.
const double* values_at(const int* rows, int count, const Column& column, double* space) {
  if (column.size == count) return column.value;  // the same rows, as usual for columns of equal structure
  const int* end = column.row + column.size;
  const bool few = column.size > 16 * count;  // then bisection: otherwise the cost is the length of the longer column
  const int* at = column.row;
  for (int a = 0; a < count; ++a, ++at) {
    at = few ? std::lower_bound(at, end, rows[a]) : std::find(at, end, rows[a]);
    space[a] = column.value[at - column.row];
  }
  return space;
}

// Z is L at first, and from the last column to the first is replaced by the inverse of L L'.
void invert_in_place(cholmod_factor& Z) {
  const auto n = static_cast<Eigen::Index>(Z.n);
  const int* start = static_cast<const int*>(Z.p);
  const int* row = static_cast<const int*>(Z.i);
  auto* value = static_cast<double*>(Z.x);
  Eigen::VectorXd unit(n), sum(n), space(n);
  double* l = unit.data();
  double* s = sum.data();
  for (Eigen::Index j = n; j-- > 0;) {
    double& diagonal = value[start[j]];
    const int* rows = row + start[j] + 1;
    double* below = value + start[j] + 1;
    const int count = start[j + 1] - start[j] - 1;
    for (int a = 0; a < count; ++a) {
      l[a] = below[a] / diagonal;
      s[a] = 0.0;
    }
    for (int a = 0; a < count; ++a) {
      const int first = start[rows[a]];
      const double* Z_k =
          values_at(rows + a, count - a, {row + first, value + first, start[rows[a] + 1] - first}, space.data());
      double own = Z_k[0] * l[a];
      for (int b = 1; b < count - a; ++b) {  // each element is read once, for Z_ik and Z_ki
        own += Z_k[b] * l[a + b];
        s[a + b] += Z_k[b] * l[a];
      }
      s[a] += own;
    }
    diagonal = 1.0 / diagonal / diagonal;
    for (int a = 0; a < count; ++a) {
      below[a] = -s[a];
      diagonal += l[a] * s[a];
    }
  }
}

}  // namespace

struct SparseCholesky::Cholmod {
  explicit Cholmod(const LowerTriangle& lower) : session(std::make_shared<Session>()), pattern(lower) {
    analyse(lower, 1);
    if (session->common.lnz > static_cast<double>(lower.nonZeros())) analyse(lower, 2);
  }
  void analyse(const LowerTriangle& lower, int methods) {
    cholmod_sparse view = view_of(lower);
    session->common.nmethods = methods;
    analysis = Factor(cholmod_analyze(&view, &session->common), {&session->common});
    session->require_success();
  }
  [[nodiscard]] cholmod_factor& numeric() const {
    if (!factor) throw std::logic_error("SparseCholesky: no factorization");
    return *factor;
  }
  [[nodiscard]] Eigen::Map<const Eigen::VectorXi> order() const {
    return {static_cast<const int*>(analysis->Perm), pattern.size};
  }

  std::shared_ptr<Session> session;
  Pattern pattern;
  Factor analysis{nullptr, {&session->common}};
  Factor factor{nullptr, {&session->common}};
};

SparseCholesky::SparseCholesky(const LowerTriangle& lower) {
  if (lower.rows() != lower.cols() || !lower.isCompressed())
    throw std::invalid_argument(fmt::format("SparseCholesky: lower is {} x {}{}, expected square and compressed", lower.rows(),
                                            lower.cols(), lower.isCompressed() ? "" : ", not compressed"));
  cholmod_ = std::make_unique<Cholmod>(lower);
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::factorize(const LowerTriangle& lower) {
  if (!lower.isCompressed() || lower.rows() != lower.cols() || Pattern(lower) != cholmod_->pattern)
    throw std::invalid_argument("SparseCholesky::factorize: lower has another pattern than the one analysed");
  cholmod_common* common = &cholmod_->session->common;
  cholmod_->factor.reset();  // before the next one: two of them would need most of the memory
  Factor factor(cholmod_copy_factor(cholmod_->analysis.get(), common), {common});
  cholmod_->session->require_success();
  cholmod_sparse view = view_of(lower);
  cholmod_factorize(&view, factor.get(), common);
  cholmod_->session->require_success();
  // CHOLMOD sets pivots from the failed one on to zero; it does not detect non-finite ones.
  const Lower L = lower_of(*factor);
  for (Eigen::Index j = 0; j < L.cols(); ++j) {
    const double pivot = L.valuePtr()[L.outerIndexPtr()[j]];
    if (!(pivot > 0.0 && std::isfinite(pivot)))
      throw NumericalError(
          "matrix is not positive definite", fmt::format("column {}", cholmod_->order()(j)),
          fmt::format("its pivot is not a positive number; {} of {} columns are eliminated before it", j, L.cols()));
  }
  cholmod_->factor = std::move(factor);
}

Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& b) const {
  cholmod_factor& L = cholmod_->numeric();
  if (b.size() != cholmod_->pattern.size)
    throw std::invalid_argument(
        fmt::format("SparseCholesky::solve: b has {} rows, expected {}", b.size(), cholmod_->pattern.size));
  cholmod_dense right = view_of(b);
  cholmod_common* common = &cholmod_->session->common;
  Eigen::VectorXd x(b.size());
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, &L, &right, common);
  cholmod_->session->require_success();
  x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution->x), b.size());
  cholmod_free_dense(&solution, common);
  return x;
}

double SparseCholesky::log_determinant() const {
  const Lower L = lower_of(cholmod_->numeric());
  double sum = 0.0;
  for (Eigen::Index j = 0; j < L.cols(); ++j) sum += std::log(L.valuePtr()[L.outerIndexPtr()[j]]);
  return 2.0 * sum;
}

namespace {

// Largest eigenvalue of a symmetric positive definite operator, lower bound.
template <class Apply>
double largest_eigenvalue(Eigen::VectorXd v, int most, const Apply& apply) {
  constexpr double kAtRest = 0.01;
  double value = 0.0;
  for (int i = 0; i < most; ++i) {
    v /= v.norm();
    const Eigen::VectorXd next = apply(v);
    const double before = std::exchange(value, v.dot(next));
    if (value - before < kAtRest * value) break;
    v = next;
  }
  return value;
}

}  // namespace

double SparseCholesky::condition(int most) const {
  const Lower L = lower_of(cholmod_->numeric());
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(L.rows());
  for (Eigen::Index j = 0; j < L.cols(); ++j)
    for (Lower::InnerIterator e(L, j); e; ++e) diagonal(e.row()) += e.value() * e.value();
  const Eigen::VectorXd scale = diagonal.cwiseSqrt();
  std::mt19937 random(1);
  const Eigen::VectorXd any =
      Eigen::VectorXd::NullaryExpr(L.rows(), [&] { return static_cast<double>(random()) / std::mt19937::max() - 0.5; });
  const double largest = largest_eigenvalue(any, most, [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    const Eigen::VectorXd half = L.transpose() * v.cwiseQuotient(scale);
    return (L * half).cwiseQuotient(scale);
  });
  const double of_inverse = largest_eigenvalue(any, most, [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    Eigen::VectorXd x = v.cwiseProduct(scale);
    L.triangularView<Eigen::Lower>().solveInPlace(x);
    L.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
    return x.cwiseProduct(scale);
  });
  return largest * of_inverse;
}

SelectedInverse SparseCholesky::invert() {
  cholmod_factor& Z = cholmod_->numeric();
  invert_in_place(Z);
  SelectedInverse inverse;
  const auto* start = static_cast<const int*>(Z.p);
  const auto entries = static_cast<std::size_t>(start[Z.n]);
  inverse.starts_ = {start, Z.n + 1};
  inverse.rows_ = {static_cast<const int*>(Z.i), entries};
  inverse.values_ = {static_cast<const double*>(Z.x), entries};
  const auto order = cholmod_->order();
  inverse.position_.resize(order.size());
  for (int k = 0; k < order.size(); ++k) inverse.position_(order(k)) = k;
  const auto free = [session = cholmod_->session](cholmod_factor* factor) { cholmod_free_factor(&factor, &session->common); };
  inverse.factor_ = std::shared_ptr<cholmod_factor>(cholmod_->factor.release(), free);
  return inverse;
}

std::size_t SparseCholesky::factor_entries() const {
  const auto* counts = static_cast<const int*>(cholmod_->analysis->ColCount);
  return std::accumulate(counts, counts + cholmod_->analysis->n, std::size_t{0},
                         [](std::size_t sum, int count) { return sum + static_cast<std::size_t>(count); });
}

double SelectedInverse::operator()(Eigen::Index i, Eigen::Index j) const {
  const auto inside = [this](Eigen::Index k) { return k >= 0 && k < position_.size(); };
  if (inside(i) && inside(j)) {
    const auto [column, row] = std::minmax({position_(i), position_(j)});
    const auto begin = rows_.begin() + starts_[static_cast<std::size_t>(column)];
    const auto end = rows_.begin() + starts_[static_cast<std::size_t>(column) + 1];
    const auto at = std::lower_bound(begin, end, row);
    if (at != end && *at == row) return values_[static_cast<std::size_t>(at - rows_.begin())];
  }
  throw std::out_of_range(fmt::format("SelectedInverse: ({}, {}) is not in the pattern of the factor", i, j));
}

Eigen::MatrixXd SelectedInverse::block(std::span<const Eigen::Index> rows) const {
  const Eigen::Index* row = rows.data();
  Eigen::MatrixXd block(std::ssize(rows), std::ssize(rows));
  for (Eigen::Index b = 0; b < block.cols(); ++b)
    for (Eigen::Index a = b; a < block.rows(); ++a) block(a, b) = block(b, a) = (*this)(row[a], row[b]);
  return block;
}

}  // namespace coast::estimate
