"""Pictures as SVG, one module a picture, for mails, reports and web pages; and SVG turned into PNG."""
