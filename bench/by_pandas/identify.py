#!/usr/bin/env python3
"""identify.py vectorised|plain CAMPAIGN RESULT.json: what `stiffscope identify CAMPAIGN --json` computes by Partial Pose, as
one would write it with pandas, numpy and scipy: identifiability, stiffnesses with K_c, their uncertainties with degrees of
freedom, outlying postures, random subsets, every load step and linearity, Cartesian stiffness by posture. `plain` loops over
rows and postures with numpy for each small matrix. printed-vectorised and printed-plain: only what the command prints without
--json, without load steps and posture by posture. estimate-vectorised and estimate-plain: the shortest script, stiffnesses
of the heaviest step without K_c and nothing else, over the joints after CAMPAIGN (23456). Both for campaigns with
`displacements` in base_link, all postures with all steps and reflectors, no link masses, flange on axis 6."""
import pathlib, sys
import numpy as np
from campaign import Description


def main(how, folder, last):
    folder = pathlib.Path(folder)
    about = Description(folder)
    if how.endswith("vectorised"):
        import vectorised as way
    else:
        import plain as way
    if how.startswith("estimate-"):
        seen = np.array([str(j) in last for j in range(1, 7)])
        with np.errstate(divide="ignore"):
            print(*(1 / way.estimate_only(about).solve(seen)).tolist())
        return
    from written import write
    write(about, folder, way.identify(about, everything=not how.startswith("printed-")), pathlib.Path(last))


if __name__ == "__main__":
    main(*sys.argv[1:4])
