"""`python -m service.gateways`: started by the service, not by people."""

from service.gateways.process import main

if __name__ == "__main__":
    main()
