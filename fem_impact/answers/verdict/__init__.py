"""The verdict on a scene; measured tests carried over to a dropped rod; camera data of one's own."""
