"""What every process of the service needs: logs, the lock on its data, the name of the installation."""
