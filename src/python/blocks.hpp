#pragma once
// Building blocks of the jobs, as functions on arrays: _coast's share of coast.blocks.

#include <pybind11/pybind11.h>

namespace coast::python {

/// Inertial and stochastic ones.
void register_blocks(pybind11::module_& module);
/// Those of carrier-phase GNSS.
void register_carrier_blocks(pybind11::module_& module);

}  // namespace coast::python
