#include "coast/record/error.hpp"

#include <fmt/format.h>

namespace coast {

namespace {
std::string message(const InputError::Parts& p) {
  std::string text;
  if (!p.file.empty()) text = p.line > 0 ? fmt::format("{}:{}: ", p.file, p.line) : fmt::format("{}: ", p.file);
  text += p.found;
  if (!p.expected.empty()) text += ", expected " + p.expected;
  if (!p.what_to_do.empty()) text += ". " + p.what_to_do;
  return text;
}
}  // namespace

InputError::InputError(Parts parts) : std::runtime_error(message(parts)), parts_(std::move(parts)) {}

NumericalError::NumericalError(const std::string& check, const std::string& epoch, const std::string& details)
    : std::runtime_error(epoch.empty() ? fmt::format("{}: {}", check, details)
                                       : fmt::format("{} at {}: {}", check, epoch, details)) {}

OutputError::OutputError(const std::string& path, const std::string& reason)
    : std::runtime_error(fmt::format("{}: cannot be written: {}", path, reason)) {}

}  // namespace coast
