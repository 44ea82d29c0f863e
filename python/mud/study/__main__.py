# SPDX-License-Identifier: MIT
"""``python -m mud.study``: the command mud_study."""

import sys

from .command import main

if __name__ == "__main__":
    sys.exit(main())
