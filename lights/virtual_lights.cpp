// virtual_lights.cpp
