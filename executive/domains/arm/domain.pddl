; What the writing arm can do. A label ?w is a waypoint in joint space.
(define (domain arm)
  (:requirements :strips)
  (:predicates
    (at ?w)            ; the arm is at ?w
    (next ?from ?to)   ; the stroke goes from ?from to ?to
    (drawn ?w))        ; the stroke has been drawn as far as ?w
  (:action reach
    :parameters (?from ?to)
    :precondition (and (at ?from) (next ?from ?to))
    :effect (and (not (at ?from)) (at ?to) (drawn ?to))))
