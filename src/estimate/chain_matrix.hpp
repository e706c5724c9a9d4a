#pragma once
// Normal equations of a chain of links, each coupled with the next and all with a border; private to the room.

#include <cstdint>

#include "coast/estimate/sparse_cholesky.hpp"

namespace coast::estimate {

/// Unknowns: `size` of every link, one link after the other, then those of the border. Symmetric; the lower triangle is kept.
class ChainMatrix {
 public:
  /// @throws std::length_error  more elements than the range of CHOLMOD's indices, 2^31
  ChainMatrix(Eigen::Index links, Eigen::Index size, Eigen::Index border);

  /// Memory of such a matrix; its factor, which has no further elements, needs as much again.
  [[nodiscard]] static std::int64_t bytes(Eigen::Index links, Eigen::Index size, Eigen::Index border);

  void set_zero();
  void add_link(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M);    ///< size x size; only its lower triangle
  void add_next(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M);    ///< rows of link + 1, columns of link
  void add_border(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M);  ///< rows of the border, columns of link
  void add_corner(const Eigen::Ref<const Eigen::MatrixXd>& M);                     ///< border x border, likewise

  [[nodiscard]] const LowerTriangle& lower() const { return lower_; }
  [[nodiscard]] Eigen::Index first_of(Eigen::Index link) const { return link * size_; }
  [[nodiscard]] Eigen::Index first_of_border() const { return links_ * size_; }
  [[nodiscard]] Eigen::Index unknowns() const { return first_of_border() + border_; }
  /// Releases the memory.
  void clear() { lower_ = LowerTriangle(); }

 private:
  [[nodiscard]] double* row(Eigen::Index r) { return lower_.valuePtr() + lower_.outerIndexPtr()[r]; }

  Eigen::Index links_, size_, border_;
  LowerTriangle lower_;
};

}  // namespace coast::estimate
