// mesh_light.cpp
