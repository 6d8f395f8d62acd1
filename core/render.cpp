// render.cpp
