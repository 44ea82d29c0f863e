# SPDX-License-Identifier: MIT
"""``python -m mud.lwd``: the command mud_lwd."""

import sys

from .command import main

if __name__ == "__main__":
    sys.exit(main())
