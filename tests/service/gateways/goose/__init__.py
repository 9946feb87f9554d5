"""The GOOSE gateway, on a real pair of Ethernet interfaces where it hears frames."""
