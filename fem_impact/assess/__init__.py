"""One dropped rod assessed by rigid theory: losses, worst case, heat; and camera data of one's own."""
