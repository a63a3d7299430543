"""`python -m lesk` is the command `lesk`."""

import sys

from lesk.cli import main

sys.exit(main())
