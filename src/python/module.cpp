// The module coast._coast: what the Python package coast (src/python/coast) is built on.

#include <pybind11/pybind11.h>

#include "blocks.hpp"
#include "errors.hpp"
#include "jobs.hpp"

PYBIND11_MODULE(_coast, module) {
  module.attr("__version__") = COAST_VERSION;
  coast::python::register_errors();
  coast::python::register_jobs(module);
  coast::python::register_blocks(module);
  coast::python::register_carrier_blocks(module);
}
