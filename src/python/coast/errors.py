"""How a job can fail. All are CoastError."""


class CoastError(Exception):
    """A job failed."""


class InputError(CoastError, ValueError):
    """Bad input or configuration.

    Attributes: file, line (from 1; 0 where there is none), found, expected, hint.
    """

    def __init__(self, message, file="", line=0, found="", expected="", hint=""):
        super().__init__(message)
        self.file, self.line, self.found, self.expected, self.hint = file, line, found, expected, hint


class NumericalError(CoastError, ArithmeticError):
    """A computation failed: no start was found, no convergence, too few data."""


class OutputError(CoastError, OSError):
    """A file could not be written."""


class UnusableResult(UserWarning):
    """A trajectory contradicts its input; its verdict says in what."""
