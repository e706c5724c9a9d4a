#include "chain_matrix.hpp"

namespace coast::estimate {

// Rows of a column of link k, from its own on: the rest of the link, the next link, the border.
ChainMatrix::ChainMatrix(Eigen::Index links, Eigen::Index size, Eigen::Index border)
    : links_(links), size_(size), border_(border), lower_(links * size + border, links * size + border) {
  Eigen::VectorXi lengths(unknowns());
  for (Eigen::Index c = 0; c < unknowns(); ++c) {
    const Eigen::Index link = c / size;
    const Eigen::Index chain_end = std::min((link + 2) * size, first_of_border());
    lengths(c) = static_cast<int>(c < first_of_border() ? chain_end - c + border : unknowns() - c);
  }
  lower_.reserve(lengths);
  for (Eigen::Index c = 0; c < unknowns(); ++c) {
    const Eigen::Index chain_end = std::min((c / size + 2) * size, first_of_border());
    for (Eigen::Index r = c; r < chain_end; ++r) lower_.insert(r, c) = 0.0;
    for (Eigen::Index r = std::max(c, first_of_border()); r < unknowns(); ++r) lower_.insert(r, c) = 0.0;
  }
  lower_.makeCompressed();
}

void ChainMatrix::set_zero() {
  lower_.coeffs().setZero();
}

void ChainMatrix::add_link(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M) {
  for (Eigen::Index j = 0; j < size_; ++j)
    Eigen::Map<Eigen::VectorXd>(column(first_of(link) + j), size_ - j) += M.col(j).tail(size_ - j);
}

void ChainMatrix::add_next(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M) {
  for (Eigen::Index j = 0; j < size_; ++j)
    Eigen::Map<Eigen::VectorXd>(column(first_of(link) + j) + size_ - j, size_) += M.col(j);
}

void ChainMatrix::add_border(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M) {
  const Eigen::Index behind = link + 1 < links_ ? size_ : 0;
  for (Eigen::Index j = 0; j < size_; ++j)
    Eigen::Map<Eigen::VectorXd>(column(first_of(link) + j) + size_ - j + behind, border_) += M.col(j);
}

void ChainMatrix::add_corner(const Eigen::Ref<const Eigen::MatrixXd>& M) {
  for (Eigen::Index j = 0; j < border_; ++j)
    Eigen::Map<Eigen::VectorXd>(column(first_of_border() + j), border_ - j) += M.col(j).tail(border_ - j);
}

}  // namespace coast::estimate
