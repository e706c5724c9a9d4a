#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "coast/record/error.hpp"
#include "command_line.hpp"
#include "interrupt.hpp"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr int kNumbersFailed = 3;

int run(int argc, char** argv) {
  coast::cli::CommandLine line;
  try {
    line.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return line.app().exit(error) == 0 ? kDone : kBadInput;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  coast::cli::keep_standard_streams();
  coast::cli::end_cleanly_on_signals();
  try {
    const int status = run(argc, argv);
    coast::cli::flush_standard_output();
    return status;
  } catch (const coast::InputError& error) {
    fmt::print(stderr, "coast: {}\n", error.what());
    return kBadInput;
  } catch (const coast::NumericalError& error) {
    fmt::print(stderr, "coast: {}\n", error.what());
    return kNumbersFailed;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "coast: out of memory\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "coast: {}\n", error.what());
    return kFailed;
  }
}
