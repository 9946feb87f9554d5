"""Pages of alarms: what to look after first, one alarm with its history, and what people do about them."""
