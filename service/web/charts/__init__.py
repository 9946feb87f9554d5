"""Charts of the pages as data; static/js/charts draws them, templates/charts/figure.html has their frame."""

from service.web.charts.chart import AxisKind, Band, Chart, Kind, Limit, Mark, Series, Table, Tone

__all__ = ["AxisKind", "Band", "Chart", "Kind", "Limit", "Mark", "Series", "Table", "Tone"]
