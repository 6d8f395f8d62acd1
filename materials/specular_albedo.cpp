// specular_albedo.cpp
