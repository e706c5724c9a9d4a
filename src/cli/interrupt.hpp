#pragma once
// Termination of the program outside of the commands.

namespace coast::cli {

/// After this call SIGINT, SIGTERM and SIGHUP remove half-written files and end the program with 128 + signal. A file size
/// limit (`ulimit -f`) and a pipe without a reader are errors of writing. Call before any thread is started.
void end_cleanly_on_signals();

/// Writing to a closed standard stream fails; its number is not reused for a file of results.
void keep_standard_streams();

/// @throws OutputError  printed text did not reach standard output
void flush_standard_output();

}  // namespace coast::cli
