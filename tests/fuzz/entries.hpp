#pragma once
// One entry per reader: any bytes at all give records that hold their promises, or an InputError. Shared by the libFuzzer
// programs and by the replay of the corpus in every build.

#include <string>
#include <string_view>
#include <vector>

namespace coast::fuzz {

struct Entry {
  std::string_view name;  ///< of the program (coast_fuzz_<name>) and of the folder under corpus/
  /// @throws std::logic_error  a reader returned records that break their contract
  void (*run)(std::string_view bytes);
};

[[nodiscard]] const std::vector<Entry>& entries();

}  // namespace coast::fuzz
