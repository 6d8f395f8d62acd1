// support.cpp
