"""Parts shared by the interactive programs: descriptions of screens, forms, drawings and the web page."""

HOME = "127.0.0.1"  # IP address of a server that only programs on this computer can reach
