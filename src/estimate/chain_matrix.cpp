#include "chain_matrix.hpp"

#include <limits>
#include <numeric>
#include <stdexcept>

namespace coast::estimate {

namespace {

std::int64_t elements(Eigen::Index links, Eigen::Index size, Eigen::Index border) {
  return links * (size * (size + 1) / 2 + size * border) + std::max<Eigen::Index>(links - 1, 0) * size * size +
         border * (border + 1) / 2;
}

}  // namespace

std::int64_t ChainMatrix::bytes(Eigen::Index links, Eigen::Index size, Eigen::Index border) {
  constexpr auto kElement = static_cast<std::int64_t>(sizeof(double) + sizeof(int));
  return elements(links, size, border) * kElement;
}

// A row of a link: the previous link, and its own up to the diagonal. A row of the border: everything up to the diagonal.
ChainMatrix::ChainMatrix(Eigen::Index links, Eigen::Index size, Eigen::Index border)
    : links_(links), size_(size), border_(border), lower_(links * size + border, links * size + border) {
  const std::int64_t count = elements(links, size, border);
  if (count > std::numeric_limits<int>::max()) throw std::length_error("ChainMatrix: more than 2^31 elements");
  lower_.resizeNonZeros(count);
  int* column = lower_.innerIndexPtr();
  int* start = lower_.outerIndexPtr();
  for (Eigen::Index r = 0; r < unknowns(); ++r) {
    const Eigen::Index first = r < first_of_border() ? std::max<Eigen::Index>(r / size - 1, 0) * size : 0;
    const auto length = static_cast<int>(r - first + 1);
    std::iota(column, column + length, static_cast<int>(first));
    column += length;
    start[r + 1] = start[r] + length;
  }
  set_zero();
}

void ChainMatrix::set_zero() {
  lower_.coeffs().setZero();
}

void ChainMatrix::add_link(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M) {
  const Eigen::Index before = link > 0 ? size_ : 0;
  for (Eigen::Index i = 0; i < size_; ++i)
    Eigen::Map<Eigen::RowVectorXd>(row(first_of(link) + i) + before, i + 1) += M.row(i).head(i + 1);
}

void ChainMatrix::add_next(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M) {
  for (Eigen::Index i = 0; i < size_; ++i) Eigen::Map<Eigen::RowVectorXd>(row(first_of(link + 1) + i), size_) += M.row(i);
}

void ChainMatrix::add_border(Eigen::Index link, const Eigen::Ref<const Eigen::MatrixXd>& M) {
  for (Eigen::Index i = 0; i < border_; ++i)
    Eigen::Map<Eigen::RowVectorXd>(row(first_of_border() + i) + first_of(link), size_) += M.row(i);
}

void ChainMatrix::add_corner(const Eigen::Ref<const Eigen::MatrixXd>& M) {
  for (Eigen::Index i = 0; i < border_; ++i)
    Eigen::Map<Eigen::RowVectorXd>(row(first_of_border() + i) + first_of_border(), i + 1) += M.row(i).head(i + 1);
}

}  // namespace coast::estimate
