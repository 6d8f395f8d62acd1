// mesh_import_test.cpp
