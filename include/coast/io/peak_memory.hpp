#pragma once

namespace coast::io {

/// The largest resident memory of this process, bytes, since its start or the last forget_peak_memory(); 0 if not known.
[[nodiscard]] double peak_memory();
/// Begins anew with the present memory, where the system allows it.
void forget_peak_memory();

}  // namespace coast::io
