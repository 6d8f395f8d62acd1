// directional.cpp
