"""`python -m lesk` is the command `lesk`."""

import sys

from lesk.cli import main

if __name__ == "__main__":
    sys.exit(main())
