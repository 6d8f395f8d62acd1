// metals.cpp
