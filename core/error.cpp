// error.cpp
