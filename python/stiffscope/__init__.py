"""stiffscope: joint stiffness of industrial robots from laser-tracker campaigns.

    import stiffscope
    day = stiffscope.open("samples/active")
    found = day.identify(method="dpp")
    found.methods.dpp.stiffness_nm_per_rad      # numpy array, one a joint, NaN where a joint is not identifiable
    print(found)                                # what the command prints

Every function does what the command of its name does, by the same code: arguments are the command's options, results
have the names of its JSON. Units are those of the names (_deg, _mm, _n, _nm_per_rad). Bad input raises InputError.
"""

from ._campaign import (Campaign, audit, calibrate, compare, compensate, diagnose, fit, frames, identify, open, plan,
                        simulate, write_campaign)
from ._core import __version__
from ._errors import InputError, InputWarning
from ._results import Columns, Record, Result, Rows

__all__ = [
    "Campaign", "Columns", "InputError", "InputWarning", "Record", "Result", "Rows", "audit", "calibrate", "compare",
    "compensate", "diagnose", "fit", "frames", "identify", "open", "plan", "simulate", "write_campaign"
]
