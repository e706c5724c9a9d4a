#pragma once
// Configurations from Python.

#include <pybind11/pybind11.h>

#include "coast/config/node.hpp"

namespace coast::python {

/// A file (str, path-like), or a dict with the keys of that file. In a dict, a table may stand where a file of numbers is
/// expected: an object of `tables` (a type of the package coast), with name, header and columns.
/// @param folder  from which relative paths of a dict count
/// @throws InputError
[[nodiscard]] config::Node tree_from(const pybind11::object& config, const std::string& folder);

}  // namespace coast::python
