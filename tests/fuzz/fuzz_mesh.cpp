// fuzz_mesh.cpp
