"""The pages: what people see of the plant in a browser, on the same repository calls as the API."""
