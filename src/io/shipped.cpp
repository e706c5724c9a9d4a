#include "coast/io/shipped.hpp"

#include <system_error>

namespace coast::io {

namespace fs = std::filesystem;

std::optional<fs::path> shipped_file(const fs::path& path) {
  constexpr const char* kFolder = "configs";
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  auto from = path.end();
  for (auto part = path.begin(); part != path.end(); ++part)
    if (*part == kFolder) from = part;
  if (failed || from == path.end()) return std::nullopt;
  fs::path file = program.parent_path().parent_path() / "share" / "coast";
  for (auto part = from; part != path.end(); ++part) file /= *part;
  file = file.lexically_normal();
  return fs::is_regular_file(file, failed) ? std::optional(file) : std::nullopt;
}

}  // namespace coast::io
