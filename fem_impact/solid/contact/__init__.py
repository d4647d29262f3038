"""Contact as velocity impulses at lumped nodes: on a rigid plane, or between two meshed surfaces."""
