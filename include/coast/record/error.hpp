#pragma once
// The three ways a run can fail, each with its exit status (STYLE: 2, 3; anything else is 1).

#include <stdexcept>
#include <string>

namespace coast {

/// Bad input or configuration: exit status 2. The message reads "file:line: found, expected expected. what_to_do".
class InputError : public std::runtime_error {
 public:
  struct Parts {
    std::string file;        ///< empty where there is none (a command-line value)
    long line = 0;           ///< 1-based; 0 where there is none
    std::string found;       ///< what is there
    std::string expected;    ///< may be empty
    std::string what_to_do;  ///< a full sentence; may be empty
  };
  explicit InputError(Parts parts);
  [[nodiscard]] const Parts& parts() const { return parts_; }

 private:
  Parts parts_;
};

/// A computation failed (covariance not positive definite, no convergence, too few data): exit status 3.
class NumericalError : public std::runtime_error {
 public:
  /// @param check what was checked  @param epoch time as text, may be empty  @param details value, bound, likely causes
  NumericalError(const std::string& check, const std::string& epoch, const std::string& details);
};

/// A file could not be written (full disk, missing folder): exit status 1, the message names the path.
class OutputError : public std::runtime_error {
 public:
  OutputError(const std::string& path, const std::string& reason);
};

}  // namespace coast
