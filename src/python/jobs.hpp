#pragma once

#include <pybind11/pybind11.h>

namespace coast::python {

/// The jobs of include/coast/jobs as functions of the module, and the results they return.
void register_jobs(pybind11::module_& module);

}  // namespace coast::python
