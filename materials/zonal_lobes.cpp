#include "materials/zonal_lobes.h"
