#include "coast/io/journal.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "coast/io/writers.hpp"

namespace coast::io {

namespace {

/// Complete lines of a file; none if it cannot be read.
std::vector<std::string> whole_lines(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  std::vector<std::string> lines;
  const std::string all = text.str();
  std::size_t begin = 0;
  for (std::size_t end = all.find('\n'); end != std::string::npos; end = all.find('\n', begin)) {
    lines.push_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

}  // namespace

Journal::Journal(const std::filesystem::path& path, std::string_view of) : path_(path), lines_(whole_lines(path)) {
  if (!lines_.empty() && lines_.front() == of)
    lines_.erase(lines_.begin());
  else
    lines_.clear();
  // Written again instead of appended to: an incomplete line would spoil the next one.
  std::string kept(of);
  kept += '\n';
  for (const std::string& line : lines_) kept += line + '\n';
  write_text(path, kept);
  file_.reset(std::fopen(path.c_str(), "ab"));
  if (!file_) throw OutputError(path.string(), std::strerror(errno));
}

void Journal::append(std::string_view line) {
  std::string text(line);
  text += '\n';
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    throw OutputError(path_.string(), std::strerror(errno));
}

void Journal::remove() {
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace coast::io
