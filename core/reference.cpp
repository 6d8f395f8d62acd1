// reference.cpp
