#pragma once
// The ends of the program that no command sees.

namespace coast::cli {

/// From here on SIGINT, SIGTERM and SIGHUP remove half-written files and end the program with 128 + signal. A file that may not
/// grow (`ulimit -f`) and a pipe without a reader are errors of writing. Call before any thread is started.
void end_cleanly_on_signals();

/// A standard stream that is closed fails when it is written to; its number does not become that of a file of results.
void keep_standard_streams();

/// @throws OutputError  what was printed did not reach standard output
void flush_standard_output();

}  // namespace coast::cli
