// compare.cpp
