#include "coast/estimate/knot.hpp"

#include <unistd.h>

#include <algorithm>
#include <bit>

#include "coast/record/error.hpp"

namespace coast::estimate {

namespace {

// A knot is a flat sequence of doubles; integers are stored by their bits. Data for the nominal trajectory come first.
class Packer {
 public:
  explicit Packer(double* out) : out_(out) {}
  void integer(std::int64_t value) { *out_++ = std::bit_cast<double>(value); }
  void real(double value) { *out_++ = value; }
  template <typename Derived>
  void matrix(const Eigen::MatrixBase<Derived>& m) {
    Eigen::Map<Eigen::MatrixXd>(out_, m.rows(), m.cols()) = m;
    out_ += m.size();
  }
  void unknown(const carrier::Unknown& u) {
    integer(static_cast<std::int64_t>(u.kind));
    integer(static_cast<std::int64_t>(u.satellite.system));
    integer(u.satellite.number);
    integer(u.band);
    integer(u.arc);
  }
  void symmetric(const Eigen::MatrixXd& m) {  // upper triangle, column by column
    for (Eigen::Index j = 0; j < m.cols(); ++j) out_ = std::copy_n(m.col(j).data(), j + 1, out_);
  }
  void increment(const ins::RawIncrement& raw) {
    real(raw.dt);
    matrix(raw.dtheta);
    matrix(raw.dv);
  }

 private:
  double* out_;
};

class Unpacker {
 public:
  explicit Unpacker(const double* in) : in_(in) {}
  std::int64_t integer() { return std::bit_cast<std::int64_t>(*in_++); }
  double real() { return *in_++; }
  Eigen::Map<const Eigen::MatrixXd> matrix(Eigen::Index rows, Eigen::Index cols) {
    const double* first = in_;
    in_ += rows * cols;
    return {first, rows, cols};
  }
  Eigen::MatrixXd symmetric(Eigen::Index n) {
    Eigen::MatrixXd m(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      std::copy_n(in_, j + 1, m.col(j).data());
      in_ += j + 1;
    }
    m.triangularView<Eigen::StrictlyLower>() = m.transpose();
    return m;
  }
  carrier::Unknown unknown() {
    carrier::Unknown u;
    u.kind = static_cast<carrier::Unknown::Kind>(integer());
    u.satellite.system = static_cast<record::SatelliteSystem>(integer());
    u.satellite.number = static_cast<std::uint8_t>(integer());
    u.band = static_cast<char>(integer());
    u.arc = static_cast<int>(integer());
    return u;
  }
  ins::RawIncrement increment() {
    ins::RawIncrement raw;
    raw.dt = real();
    raw.dtheta = matrix(3, 1);
    raw.dv = matrix(3, 1);
    return raw;
  }

 private:
  const double* in_;
};

std::size_t nominal_size(Eigen::Index n) {
  return static_cast<std::size_t>(2 + 10 + n + 7 + 1 + 7 + 2);
}

std::size_t packed_size(const Knot& knot) {
  const auto n = knot.post.x.size();
  Eigen::Index size = n * (n + 1) / 2 + 1 + knot.Phi_n.size() + 1;
  size += 2 + 5 * static_cast<Eigen::Index>(knot.slots.size()) + knot.slot_factors.size();
  for (const AppliedUpdate& u : knot.updates) size += 2 + u.H.size() + u.K.size() + u.S_inv.size() + u.y.size();
  return nominal_size(n) + static_cast<std::size_t>(size);
}

Knot unpack_nominal(Unpacker& unpack) {
  Knot knot;
  const Eigen::Index n = unpack.integer();
  knot.post.nav.t = geo::GpsTime::from_nanoseconds(unpack.integer());
  knot.post.nav.r_eb_e = unpack.matrix(3, 1);
  knot.post.nav.v_eb_e = unpack.matrix(3, 1);
  knot.post.nav.q_b_e.coeffs() = unpack.matrix(4, 1);
  knot.post.x = unpack.matrix(n, 1);
  knot.post.previous = unpack.increment();
  knot.next_sample = static_cast<std::size_t>(unpack.integer());
  knot.remainder = unpack.increment();
  knot.interval = unpack.real();
  knot.renews_gnss_error = unpack.integer() != 0;
  return knot;
}

}  // namespace

KnotStore::KnotStore(std::size_t memory_limit_bytes) : limit_(memory_limit_bytes / sizeof(double)) {}

void KnotStore::append(const Knot& knot) {
  if (memory_.size() > limit_) spill();
  const std::size_t begin = memory_.size();
  const std::size_t size = packed_size(knot);
  if (memory_.capacity() == 0) memory_.reserve(limit_ + 2 * size);  // unused it costs nothing, growing would copy it all
  offsets_.push_back(spilled_ + begin);
  times_.push_back(knot.post.nav.t);
  memory_.resize(begin + size);
  Packer pack(memory_.data() + begin);
  pack.integer(knot.post.x.size());
  pack.integer(knot.post.nav.t.nanoseconds());
  pack.matrix(knot.post.nav.r_eb_e);
  pack.matrix(knot.post.nav.v_eb_e);
  pack.matrix(knot.post.nav.q_b_e.coeffs());
  pack.matrix(knot.post.x);
  pack.increment(knot.post.previous);
  pack.integer(static_cast<std::int64_t>(knot.next_sample));
  pack.increment(knot.remainder);
  pack.real(knot.interval);
  pack.integer(knot.renews_gnss_error ? 1 : 0);
  pack.symmetric(knot.P_post);
  pack.integer(knot.Phi_n.cols());
  pack.matrix(knot.Phi_n);
  pack.integer(static_cast<std::int64_t>(knot.slots.size()));
  for (const carrier::Unknown& unknown : knot.slots) pack.unknown(unknown);
  pack.integer(knot.slot_factors.size());
  pack.matrix(knot.slot_factors);
  pack.integer(static_cast<std::int64_t>(knot.updates.size()));
  for (const AppliedUpdate& update : knot.updates) {
    pack.integer(static_cast<std::int64_t>(update.kind));
    pack.integer(update.y.size());
    pack.matrix(update.H);
    pack.matrix(update.K);
    pack.matrix(update.S_inv);
    pack.matrix(update.y);
  }
}

void KnotStore::clear() {
  memory_.clear();
  file_.reset();
  spilled_ = 0;
  offsets_.clear();
  times_.clear();
}

void KnotStore::spill() {
  if (!file_) file_.reset(std::tmpfile());
  if (!file_) throw OutputError("temporary file of the smoother", "cannot be opened");
  const bool written = std::fwrite(memory_.data(), sizeof(double), memory_.size(), file_.get()) == memory_.size();
  if (!written || std::fflush(file_.get()) != 0) throw OutputError("temporary file of the smoother", "the disk is full");
  spilled_ += memory_.size();
  memory_.clear();
}

namespace {

/// Without a position in the file, which threads would have to share.
void read_at(int file, std::size_t from, std::vector<double>& values) {
  auto* const bytes = reinterpret_cast<char*>(values.data());
  const std::size_t size = values.size() * sizeof(double);
  for (std::size_t done = 0; done < size;) {
    const ssize_t got = pread(file, bytes + done, size - done, static_cast<off_t>(from + done));
    if (got <= 0) throw OutputError("temporary file of the smoother", "cannot be read back");
    done += static_cast<std::size_t>(got);
  }
}

}  // namespace

const double* KnotStore::data(std::size_t index, std::size_t count, std::vector<double>& buffer) const {
  const std::size_t begin = offsets_[index];
  if (begin >= spilled_) return memory_.data() + (begin - spilled_);
  const std::size_t end = index + 1 < offsets_.size() ? offsets_[index + 1] : spilled_ + memory_.size();
  buffer.resize(count > 0 ? std::min(count, end - begin) : end - begin);
  read_at(fileno(file_.get()), begin * sizeof(double), buffer);
  return buffer.data();
}

Knot KnotStore::at(std::size_t index) const {
  std::vector<double> buffer;
  Unpacker unpack(data(index, 0, buffer));
  Knot knot = unpack_nominal(unpack);
  const Eigen::Index n = knot.post.x.size();
  knot.P_post = unpack.symmetric(n);
  const Eigen::Index columns = unpack.integer();
  knot.Phi_n = unpack.matrix(kNav, columns);
  knot.slots.resize(static_cast<std::size_t>(unpack.integer()));
  for (carrier::Unknown& unknown : knot.slots) unknown = unpack.unknown();
  const Eigen::Index factors = unpack.integer();
  knot.slot_factors = unpack.matrix(factors, 1);
  knot.updates.resize(static_cast<std::size_t>(unpack.integer()));
  for (AppliedUpdate& update : knot.updates) {
    update.kind = static_cast<UpdateKind>(unpack.integer());
    const Eigen::Index m = unpack.integer();
    update.H = unpack.matrix(m, n);
    update.K = unpack.matrix(n, m);
    update.S_inv = unpack.matrix(m, m);
    update.y = unpack.matrix(m, 1);
  }
  return knot;
}

Knot KnotStore::nominal_at(std::size_t index) const {
  std::vector<double> buffer;
  // The number of states comes first; one double is read twice to avoid reading the covariance.
  const auto n = static_cast<Eigen::Index>(std::bit_cast<std::int64_t>(*data(index, 1, buffer)));
  Unpacker unpack(data(index, nominal_size(n), buffer));
  return unpack_nominal(unpack);
}

}  // namespace coast::estimate
