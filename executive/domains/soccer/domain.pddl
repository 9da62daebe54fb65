; What the soccer robot can do. A label ?p is a place: see library.py for what its values mean.
(define (domain soccer)
  (:requirements :strips)
  (:predicates
    (robot ?p)         ; the robot is at ?p
    (ball ?p)          ; the ball lies at ?p
    (atball ?p)        ; the robot has the ball before it at ?p
    (final ?p)         ; ?p is where the ball is to go
    (route ?from ?to)  ; ?to comes after ?from
    (visited ?p))
  (:action gotopose
    :parameters (?from ?to)
    :precondition (and (robot ?from) (route ?from ?to))
    :effect (and (not (robot ?from)) (robot ?to) (visited ?to)))
  (:action approachball
    :parameters (?from ?to)
    :precondition (and (robot ?from) (ball ?to))
    :effect (and (not (robot ?from)) (robot ?to) (atball ?to)))
  (:action dribbleball
    :parameters (?from ?to)
    :precondition (and (atball ?from))
    :effect (and (not (atball ?from)) (not (ball ?from)) (not (robot ?from)) (atball ?to) (ball ?to) (robot ?to))))
