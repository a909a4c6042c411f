"""`python3 cattaneo_show RUN.json --plot FILE`: the folder is run as it is."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from cattaneo_show.command import main  # noqa: E402

sys.exit(main())
