// sampling.cpp
