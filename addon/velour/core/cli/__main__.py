import sys

try:
    from .main import main

    sys.exit(main())
except KeyboardInterrupt:  # before main() could handle it
    sys.exit(130)
