#!/usr/bin/env python3
"""What a person sees of the program at a terminal, through a pseudo-terminal: no line of progress wraps or stays, Ctrl-C
leaves a clean line, verdicts are in colour. Usage: terminal_test.py STIFFSCOPE SAMPLES"""
import fcntl
import os
import pty
import re
import select
import signal
import struct
import sys
import tempfile
import termios
import unittest

PROGRAM, SAMPLES = sys.argv.pop(1), sys.argv.pop(1)


class Screen:
    """As much of a terminal as the program asks for: letters, return, new line, `erase to the end of the line`."""

    def __init__(self, columns):
        self.columns, self.lines, self.column, self.wraps = columns, [""], 0, 0

    def take(self, text):
        for part in re.findall(r"\x1b\[[0-9;]*[A-Za-z]|.", text, re.DOTALL):
            if part == "\r":
                self.column = 0
            elif part == "\n":
                self.lines.append("")
                self.column = 0
            elif part == "\x1b[K":
                self.lines[-1] = self.lines[-1][: self.column]
            elif not part.startswith("\x1b"):
                if self.column == self.columns:
                    self.wraps += 1
                    self.lines.append("")
                    self.column = 0
                line = self.lines[-1].ljust(self.column)
                self.lines[-1] = line[: self.column] + part + line[self.column + 1 :]
                self.column += 1


def run(words, columns, end_when=None, **environment):
    """Runs the program at a terminal so wide; presses Ctrl-C where `end_when` stands in what it wrote. Returns the state
    of wait, the bytes as text, and the screen as it is left."""
    child, terminal = pty.fork()
    if child == 0:
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        os.environ.update({"TERM": "xterm-256color", **environment})
        try:
            os.execv(PROGRAM, [PROGRAM, *words])
        finally:
            os._exit(127)
    written = b""
    while select.select([terminal], [], [], 300)[0]:
        try:
            part = os.read(terminal, 65536)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        written += part
        if end_when and end_when in written:
            os.write(terminal, b"\x03")
            end_when = None
    os.close(terminal)
    state = os.waitpid(child, 0)[1]
    text = written.decode()
    screen = Screen(columns)
    screen.take(text)
    return state, text, screen


class AtATerminal(unittest.TestCase):
    def test_progress_fits_and_does_not_stay(self):
        with tempfile.TemporaryDirectory() as folder:
            state, text, screen = run(["report", SAMPLES + "/active", "--springs-only", "--out", folder + "/out"], 50)
        self.assertEqual(state, 0)
        said = re.findall(r"\r\x1b\[K(stiffscope report: [^\r]+)", text)
        if not said:
            self.skipTest("it was over in two seconds")
        self.assertLess(max(map(len, said)), 50)
        self.assertEqual(len(said), len([a for a, b in zip(said, [""] + said) if a != b]), "written anew without news")
        self.assertNotIn("stiffscope report:", "\n".join(screen.lines))
        self.assertTrue(screen.lines[0].endswith("report.html") or screen.wraps, screen.lines)

    def test_ctrl_c_leaves_a_clean_line(self):
        with tempfile.TemporaryDirectory() as folder:
            samples = [SAMPLES + "/inactive", SAMPLES + "/active"]
            state, text, screen = run(["report", *samples, "--out", folder + "/out"], 80, b"\x1b[Kstiffscope report: ")
            self.assertEqual(os.listdir(folder), [])
        if os.WIFEXITED(state):
            self.skipTest("it was over before the key")
        self.assertEqual(os.WTERMSIG(state), signal.SIGINT)
        self.assertIn("stiffscope report: ", text)
        self.assertEqual(screen.lines, [""])

    def test_colours_are_for_terminals_that_want_them(self):
        colour = r"\x1b\[[0-9;]*m"  # a line of progress is cleared, with and without colour
        self.assertRegex(run(["audit", SAMPLES + "/active"], 100)[1], colour)
        self.assertNotRegex(run(["audit", SAMPLES + "/active"], 100, NO_COLOR="1")[1], colour)
        self.assertNotIn("\x1b", run(["audit", SAMPLES + "/active"], 100, TERM="dumb")[1])

    def test_the_screen_sees_faults(self):
        screen = Screen(10)
        screen.take("\r\x1b[K0123456789ab\r\x1b[Kx")
        self.assertEqual((screen.wraps, screen.lines), (1, ["0123456789", "x"]))


if __name__ == "__main__":
    unittest.main()
