"""How long until other hosts do the work of one that is killed, frozen or cut off."""
