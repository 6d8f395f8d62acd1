// environment.cpp
