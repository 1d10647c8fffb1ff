"""File formats: one file each; each names its reader, its convention and what it cannot hold."""
