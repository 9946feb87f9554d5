"""The client package: made from the OpenAPI document, and tried as its users would."""
