// image.cpp
