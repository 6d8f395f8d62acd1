// mesh_import.cpp
