"""Every COMTRADE, CEV and SCL file of a folder: read by the project, and compared with other readers."""
