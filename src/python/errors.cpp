#include "errors.hpp"

#include <pybind11/pybind11.h>

#include "coast/record/error.hpp"

namespace coast::python {

namespace py = pybind11;

namespace {

py::object class_of(const char* name) {
  return py::module_::import("coast.errors").attr(name);
}

void raise(const char* name, const char* text) {
  PyErr_SetString(class_of(name).ptr(), text);
}

void raise(const InputError& error) {
  const InputError::Parts& parts = error.parts();
  const py::object type = class_of("InputError");
  const py::object value = type(error.what(), parts.file, parts.line, parts.found, parts.expected, parts.what_to_do);
  PyErr_SetObject(type.ptr(), value.ptr());
}

}  // namespace

void register_errors() {
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11's type
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& e) {
      raise(e);
    } catch (const NumericalError& e) {
      raise("NumericalError", e.what());
    } catch (const OutputError& e) {
      raise("OutputError", e.what());
    }
  });
}

}  // namespace coast::python
