import sys

try:
    from .main import main

    sys.exit(main())
except KeyboardInterrupt:  # before main() could take care of it
    sys.exit(130)
