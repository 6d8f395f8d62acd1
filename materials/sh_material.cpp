#include "materials/sh_material.h"
