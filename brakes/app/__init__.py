"""The interactive program: screens of a forklift's brakes, drum brakes and calipers."""
