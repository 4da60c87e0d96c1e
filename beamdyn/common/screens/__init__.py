"""Parts shared by the interactive programs: descriptions of screens, forms, designs and the page."""

HOME = "127.0.0.1"  # address of a server that only this computer can reach
