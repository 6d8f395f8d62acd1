// Under way: the material database on top of the projector.
