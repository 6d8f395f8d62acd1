// vpl.cpp
