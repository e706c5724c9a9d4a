#pragma once

namespace coast::python {

/// coast's errors become those of coast.errors: InputError with file, line, found, expected and hint.
void register_errors();

}  // namespace coast::python
