// sphere.cpp
