"""The page on which photographs are taken live, with what to do over the picture."""
