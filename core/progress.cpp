// progress.cpp
