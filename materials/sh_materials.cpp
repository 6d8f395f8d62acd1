#include "materials/sh_materials.h"
