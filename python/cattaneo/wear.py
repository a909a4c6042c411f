"""Fretting wear: the wear depth of Archard's law is added to the gap cycle by cycle, in jumps, or in one step to the final state.

    law = wear.WearLaw.uniform(problem, 1e-4)
    report = wear.wear(problem, law, history, 1e6, settings=wear.WearSettings(tolerance=1e-3))
    end = wear.worn_out(problem, history)
"""

from ._core.wear import (
    WearLaw as WearLaw,
    WearRecord as WearRecord,
    WearReport as WearReport,
    WearSettings as WearSettings,
    WearState as WearState,
    WornOut as WornOut,
    load_wear_state as load_wear_state,
    wear as wear,
    worn_depth as worn_depth,
    worn_out as worn_out,
    worn_volume as worn_volume,
)
