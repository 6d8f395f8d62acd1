// debug.cpp
