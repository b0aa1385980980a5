"""What is wrong with an input, and where."""

_POSITIONAL = {"SHAPE": "shape", "CAMPAIGN": "campaign"}


class InputError(ValueError):
    """Bad input: a file, an array or an argument that cannot be meant.

    file, line, column  where it stands; of an array the argument's name, the row counted from 1, and the column;
                        None for what does not apply
    argument            the keyword argument that was refused; None for a file or an array
    value, expected     what stands there, and what was expected
    """

    def __init__(self, message, file=None, line=None, column=None, value=None, expected=None):
        self.argument = None
        if file and (file.startswith("--") or file in _POSITIONAL):
            self.argument = _POSITIONAL.get(file, file.lstrip("-").replace("-", "_"))
            if self.argument == "with":
                self.argument = "with_"
            message = message.replace(file, self.argument, 1)
            file = None
        super().__init__(message)
        self.file = file or None
        self.line = line or None
        self.column = column or None
        self.value = value or None
        self.expected = expected or None

    def __reduce__(self):
        return (_restored, (str(self), dict(self.__dict__)))


def _restored(message, state):
    error = InputError(message)
    error.__dict__.update(state)
    return error


class InputWarning(UserWarning):
    """Something about the input that is worth a look and not refused."""
