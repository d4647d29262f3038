"""The command line: options in, text out; computes nothing itself."""
