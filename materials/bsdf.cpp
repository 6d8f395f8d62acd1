// bsdf.cpp
