#pragma once
// Normal equations of a chain of links, each tied to the next and all to a border; private to the room.

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace coast::estimate {

/// Unknowns: `size` of every link, one link after the other, then those of the border. Symmetric; the lower triangle is kept.
class ChainMatrix {
 public:
  ChainMatrix(Eigen::Index links, Eigen::Index size, Eigen::Index border);

  void set_zero();
  void add_link(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M);    ///< size x size
  void add_next(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M);    ///< rows of link + 1, columns of link
  void add_border(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M);  ///< rows of the border, columns of link
  void add_corner(const Eigen::Ref<const Eigen::MatrixXd>& M);                     ///< border x border

  [[nodiscard]] const Eigen::SparseMatrix<double>& lower() const { return lower_; }
  [[nodiscard]] Eigen::Index first_of(Eigen::Index link) const { return link * size_; }
  [[nodiscard]] Eigen::Index first_of_border() const { return links_ * size_; }
  [[nodiscard]] Eigen::Index unknowns() const { return first_of_border() + border_; }

 private:
  [[nodiscard]] double* column(Eigen::Index c) { return lower_.valuePtr() + lower_.outerIndexPtr()[c]; }

  Eigen::Index links_, size_, border_;
  Eigen::SparseMatrix<double> lower_;
};

}  // namespace coast::estimate
