"""SEL event reports in the compressed ASCII format (.CEV): read and written."""
