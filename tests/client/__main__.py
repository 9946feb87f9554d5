"""`make client`: writes what the client package has from the OpenAPI document."""

from tests.client.generated import PACKAGE, files


def main() -> None:
    for name, text in files().items():
        (PACKAGE / name).write_text(text)


if __name__ == "__main__":
    main()
