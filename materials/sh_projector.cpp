#include "materials/sh_projector.h"
