// libFuzzer's door. One source for all programs: the entry is chosen by the program's name, coast_fuzz_<entry>.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzz/entries.hpp"

namespace {
const coast::fuzz::Entry* chosen = nullptr;  // set once by libFuzzer before the first input
}

extern "C" int LLVMFuzzerInitialize(int*, char*** argv) {
  const std::string program = std::filesystem::path((*argv)[0]).filename().string();
  for (const auto& entry : coast::fuzz::entries())
    if (program == "coast_fuzz_" + std::string(entry.name)) chosen = &entry;
  if (chosen == nullptr) std::abort();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
