"""Many runs: executors, the store of outcomes, the forecast of their time."""
