// film_test.cpp
