#include "byte_window.hpp"

#include <cstring>

namespace coast::io {

std::string_view ByteWindow::ahead(std::size_t least) {
  if (end_ - begin_ < least && !exhausted_) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    before_ += begin_;
    end_ -= begin_;
    begin_ = 0;
    const std::size_t wanted = buffer_.size() - end_;
    const std::size_t n = source_.read(buffer_.data() + end_, wanted);
    end_ += n;
    exhausted_ = n < wanted;
  }
  return {buffer_.data() + begin_, end_ - begin_};
}

}  // namespace coast::io
