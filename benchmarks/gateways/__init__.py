"""What gateways to other systems take with 500 motors, and how soon they tell a change."""
