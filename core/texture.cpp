// texture.cpp
