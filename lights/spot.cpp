// spot.cpp
