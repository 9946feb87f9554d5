"""`python -m service.collector`: started by the service, not by people."""

from service.collector.gateway.process import main

if __name__ == "__main__":
    main()
