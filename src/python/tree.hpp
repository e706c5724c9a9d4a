#pragma once
// Configurations from Python.

#include <pybind11/pybind11.h>

#include <string>
#include <string_view>

#include "coast/config/node.hpp"

namespace coast::python {

/// A file (str, path-like), or a dict with the keys of that file, in which a coast.Table may stand for a file of numbers.
/// @param folder  from which relative paths of a dict count
/// @throws InputError
[[nodiscard]] config::Node tree_from(const pybind11::object& config, const std::string& folder);
/// @param command  of the program, for which the configuration has to be
/// @throws InputError
[[nodiscard]] config::Node tree_from(const pybind11::object& config, const std::string& folder, std::string_view command);

}  // namespace coast::python
